function inkwell_take_over(arm)
% inkwell_take_over(arm)  Takes the arm over from its current driver. The driver's force fades.
  inkwell_mex('take_over', arm);
end
