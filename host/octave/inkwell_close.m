function inkwell_close(arm)
% inkwell_close(arm)  Lets this program's force fade and forgets the arm.
  inkwell_mex('close', arm);
end
