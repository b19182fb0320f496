function inkwell_hand(arm, target_m, stiffness_N_per_m)
% inkwell_hand(arm, [x y z])      The simulated hand of a virtual board lifts the stylus and pulls it to this position
%                                 with a spring of 300 N/m.
% inkwell_hand(arm, [x y z], k)   Does the same with a spring of k N/m.
% inkwell_hand(arm)               The simulated hand releases the stylus.
  if nargin < 2
    inkwell_mex('hand', arm);
  else
    if nargin < 3
      stiffness_N_per_m = 300;
    end
    inkwell_mex('hand', arm, target_m, stiffness_N_per_m);
  end
end
