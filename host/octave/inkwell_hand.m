function inkwell_hand(arm, target_m, stiffness_N_per_m)
% inkwell_hand(arm, [x y z])      The simulated hand of a virtual board takes the stylus and pulls it there, as a spring
%                                 of 300 N/m does.
% inkwell_hand(arm, [x y z], k)   As a spring of k N/m does.
% inkwell_hand(arm)               It lets go.
  if nargin < 2
    inkwell_mex('hand', arm);
  else
    if nargin < 3
      stiffness_N_per_m = 300;
    end
    inkwell_mex('hand', arm, double(target_m), double(stiffness_N_per_m));
  end
end
