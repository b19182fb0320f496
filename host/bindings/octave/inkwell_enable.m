function inkwell_enable(arm, on)
% inkwell_enable(arm)         Switches the force on. Afterwards the hand may feel a force.
% inkwell_enable(arm, false)  Switches the force off.
  if nargin < 2
    on = true;
  end
  inkwell_mex('enable', arm, on);
end
