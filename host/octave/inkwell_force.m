function inkwell_force(arm, force_N)
% inkwell_force(arm, [x y z])  The force on the hand, N, until the next call; it fades when none comes for 50 ms.
%
% Once a fault, another program or a lost link has switched the force off, it is an error with the identifier
% 'inkwell:force_lost' that names the cause, until inkwell_enable switches the force on again.
  inkwell_mex('force', arm, double(force_N));
end
