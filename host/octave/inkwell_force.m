function inkwell_force(arm, force_N)
% inkwell_force(arm, [x y z])  The force on the hand, N, until the next call; it fades when none comes for 50 ms.
  inkwell_mex('force', arm, double(force_N));
end
