function pose = inkwell_pose(arm)
% pose = inkwell_pose(arm)  Waits for the next pose. The board sends one pose per millisecond.
%
%   pose.time_s         board time, s
%   pose.state          'starting', 'unreferenced', 'ready', 'active' (the force is on) or 'fault'
%   pose.is_referenced  true while the encoders are referenced; else position, joints and rotation are not valid
%   pose.position_m     position of the probe, m, 3 x 1
%   pose.velocity_m_s   velocity of the probe over the last 8 ms, m/s, 3 x 1
%   pose.rotation       rotation of the stylus, 3 x 3; the columns are its x, y and z axes
%   pose.gimbal_rad, pose.joint_rad, pose.force_N    3 x 1
%   pose.limited_by_force     true while the force is limited to force_limit_N, or is rising to it
%   pose.limited_by_current   true while a motor is at its current limit; all motors are scaled down together
%   pose.limited_by_change    true while the force changes at the rate force_change_N_per_s
%   pose.limited_by_energy    true while the energy reserve is used up; the force along the motion is scaled down
%   pose.limited_by_heat      true while a hot motor is at its reduced current limit; all motors are scaled down
%   pose.limited_by_speed     true while the probe is close to the speed limit; the force along the motion is scaled down
%   pose.limited_by_motors    true while no motor receives current, because a motor is missing or unknown
%   pose.button_1, pose.button_2, pose.in_inkwell    true or false
%
% While no poses arrive (unplugged cable, restarted or silent board), the function raises an error with the identifier
% 'inkwell:disconnected'. inkwell_last_pose then returns the last known pose. The arm is connected again by itself.
  pose = inkwell_mex('pose', arm);
end
