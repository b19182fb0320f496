function abilities = inkwell_abilities(arm)
% abilities = inkwell_abilities(arm)  Capabilities of the arm, from its parameters.
%
%   abilities.workspace_minimum_m, abilities.workspace_maximum_m   box of the arm, 3 x 1
%   abilities.workspace_radius_m                                   of the largest sphere in the box
%   abilities.reach_minimum_m, abilities.reach_maximum_m           range of the probe within the joint stops, 3 x 1
%   abilities.joint_minimum_rad, abilities.joint_maximum_rad       joint stops; the third is relative to link 2, 3 x 1
%   abilities.third_joint_is_absolute                              true: joint 3 is measured from the base
%   abilities.force_N, abilities.continuous_force_N                largest force, and the force that lasts
%   abilities.joint_torque_Nm, abilities.continuous_joint_torque_Nm    3 x 1
%   abilities.stiffness_N_per_m, abilities.damping_Ns_per_m        recommended maxima for forces of a script
%   abilities.pose_rate_Hz
  abilities = inkwell_mex('abilities', arm);
end
