function [position_m, jacobian] = inkwell_kinematics(arm, joint_rad)
% [position_m, jacobian] = inkwell_kinematics(arm, joint_rad)  Position of the probe (3 x 1) and Jacobian (3 x 3, m/rad)
%                                                              for three joint angles.
%
% On the Omni, joint 1 is positive to the left, and joint 2 is the elevation of link 2. Joint 3 is the direction of link
% 3, measured from the base; at 0 link 3 points straight down.
  [position_m, jacobian] = inkwell_mex('kinematics', arm, joint_rad);
end
