function inkwell_hand_path(arm, path)
% inkwell_hand_path(arm, [t x y z; ...])  Moves the target of the simulated hand smoothly through these points. The hand
%   must hold the stylus (inkwell_hand). t is the board time from now on in s and rises; x, y and z are in m.
  inkwell_mex('hand_path', arm, path);
end
