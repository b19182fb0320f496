function pose = inkwell_last_pose(arm)
% pose = inkwell_last_pose(arm)  The last known pose, without waiting.
%
% The struct is that of inkwell_pose. While no poses come, inkwell_pose is an error with the identifier
% 'inkwell:disconnected'; this function still returns where the stylus was seen last.
  pose = inkwell_mex('last_pose', arm);
end
