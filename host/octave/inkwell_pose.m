function pose = inkwell_pose(arm)
% pose = inkwell_pose(arm)  Waits for the next pose; there is one each millisecond.
%
%   pose.time_s         board time, s
%   pose.state          'starting', 'unreferenced', 'ready', 'active' (the force is on) or 'fault'
%   pose.is_referenced  true while the arm knows where it is; else position, joints and rotation mean nothing
%   pose.position_m     of the probe, where the stylus is held, m, 3 x 1
%   pose.velocity_m_s   over the last 8 ms, m/s, 3 x 1
%   pose.rotation       of the stylus, 3 x 3; the columns are its x, y and z axis
%   pose.gimbal_rad, pose.joint_rad, pose.force_N    3 x 1
%   pose.limited_by_force     true while it is held at force_limit_N, or is on its way up to it
%   pose.limited_by_current   true while a motor gives all the current that it may; all give way together
%   pose.limited_by_change    true while the force changes as fast as force_change_N_per_s lets it
%   pose.limited_by_energy    true while the hand got all the energy that it may: what drives the motion gives way
%   pose.limited_by_heat      true while a hot motor gives all the current that it still may; all give way together
%   pose.limited_by_speed     true while the probe is nearly as fast as it may be: what drives the motion gives way
%   pose.button_1, pose.button_2, pose.in_inkwell    true or false
%
% While no poses come (unplugged cable, restarted or silent board) it is an error with the identifier
% 'inkwell:disconnected', and inkwell_last_pose returns the last known pose. The arm is back by itself.
  pose = inkwell_mex('pose', arm);
end
