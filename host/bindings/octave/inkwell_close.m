function inkwell_close(arm)
% inkwell_close(arm)  Fades this program's force and closes the arm.
  inkwell_mex('close', arm);
end
