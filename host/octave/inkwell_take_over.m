function inkwell_take_over(arm)
% inkwell_take_over(arm)  Takes the arm over from the program that drives it. That program's force fades.
  inkwell_mex('take_over', arm);
end
