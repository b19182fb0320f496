function force_N = inkwell_joint_torques(arm, varargin)
% inkwell_joint_torques(arm, torque_Nm)                        Sets the force that requires these joint torques at the
%                                                              newest pose, as inkwell_force does.
% force_N = inkwell_joint_torques(arm, joint_rad, torque_Nm)   Returns the force that requires these torques at these
%                                                              joint angles, 3 x 1.
%
% Both forms raise an error if the arm is stretched or folded, because no force has these torques.
  if nargin > 2
    force_N = inkwell_mex('joint_torques', arm, varargin{:});
  else
    inkwell_mex('joint_torques', arm, varargin{:});
  end
end
