function inkwell_force(arm, force_N)
% inkwell_force(arm, [x y z])  Sets the force on the hand, N, until the next call. The force fades after 50 ms
%                              without a call.
%
% After a fault, another program or a lost link has switched the force off, each call raises an error with the cause. The
% error identifier is 'inkwell:force_lost'. inkwell_enable switches the force on again.
  inkwell_mex('force', arm, force_N);
end
