function inkwell_enable(arm, on)
% inkwell_enable(arm)         Switches the force on: a hand may feel it from here on.
% inkwell_enable(arm, false)  Switches it off.
  if nargin < 2
    on = true;
  end
  inkwell_mex('enable', arm, double(on));
end
