function way_m = feel_moving_ball(arm, duration_s)
% way_m = feel_moving_ball(arm, duration_s)  A ball that moves from side to side and pushes the hand. Returns the range
%                                            of the probe along x.
  amplitude_m = 0.02;
  turns_rad_per_s = 2 * pi * 0.5;
  ball = inkwell_scene_add(arm, 'sphere', 0.015, 'rubber', [0 0 -0.03]);
  inkwell_enable(arm);
  pose = inkwell_pose(arm);
  end_s = pose.time_s + duration_s;
  x_m = [];
  while pose.time_s < end_s
    phase_rad = turns_rad_per_s * pose.time_s;
    % The velocity moves the ball evenly between two calls.
    velocity_m_per_s = [amplitude_m * turns_rad_per_s * cos(phase_rad), 0, 0];
    inkwell_scene_move(arm, ball, [amplitude_m * sin(phase_rad), 0, -0.03], [], velocity_m_per_s);
    inkwell_sleep(arm, 0.01);
    pose = inkwell_pose(arm);
    x_m(end + 1) = pose.position_m(1);
  end
  inkwell_scene_remove(arm, ball);
  way_m = max(x_m) - min(x_m);
end
