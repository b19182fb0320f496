function inkwell_hand(arm, target_m, stiffness_N_per_m, damping_Ns_per_m)
% inkwell_hand(arm, [x y z])        The simulated hand of a virtual board lifts the stylus and pulls it to this position
%                                   with a spring of 300 N/m.
% inkwell_hand(arm, [x y z], k)     Does the same with a spring of k N/m.
% inkwell_hand(arm, [x y z], k, d)  Does the same with a damping of d Ns/m.
% inkwell_hand(arm)                 The simulated hand releases the stylus.
%
% For an arm that was opened as 'usbip:...', call inkwell_connect_hand first.
  if nargin < 2
    inkwell_mex('hand', arm);
    return;
  end
  if nargin < 3
    stiffness_N_per_m = 300;
  end
  if nargin < 4
    inkwell_mex('hand', arm, target_m, stiffness_N_per_m);
  else
    inkwell_mex('hand', arm, target_m, stiffness_N_per_m, damping_Ns_per_m);
  end
end
