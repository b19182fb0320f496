function pose = inkwell_last_pose(arm)
% pose = inkwell_last_pose(arm)  Returns the last known pose without waiting.
%
% The struct has the fields of inkwell_pose. While no poses arrive, inkwell_pose raises an error with the identifier
% 'inkwell:disconnected'. This function still returns the last known pose.
  pose = inkwell_mex('last_pose', arm);
end
