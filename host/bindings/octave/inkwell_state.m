function state = inkwell_state(arm)
% state = inkwell_state(arm)  The newest pose with speeds and times, without waiting.
%
%   state.pose                        see inkwell_pose
%   state.received_s                  host time of the pose's arrival, s since 1970
%   state.quaternion                  rotation of the stylus as x, y, z, w, 4 x 1
%   state.angular_velocity_rad_per_s  of the stylus in workspace axes, over the last 8 ms, 3 x 1
%   state.joint_speed_rad_per_s       over the last 8 ms, 3 x 1
%   state.joint_torque_Nm             that pose.force_N requires, 3 x 1
  state = inkwell_mex('state', arm);
end
