function fit = identify_friction(arm, picture)
% fit = identify_friction(arm, picture)  Identifies the friction of the stylus along x and plots it.
%
% The program moves the stylus back and forth with a spring for six seconds. It records the required force and fits
%
%   force_N = coulomb_N * sign(velocity) + viscous_Ns_per_m * velocity + stiffness_N_per_m * x + offset_N
%
% Move the stylus to the middle of the box, and release it when the spring holds it, within a second. The simulated
% hand of an arm that was opened as 'virtual' does this without a call. A hand that holds the stylus adds its stiffness
% and damping, so the function then raises an error. `picture` is the name of a PNG file.
  centre_m = [0; 0; -0.03];
  amplitude_m = 0.02;
  frequency_Hz = 0.5;
  spring_N_per_m = 200;
  damping_Ns_per_m = 1;
  duration_s = 6;
  catch_s = 0.5;
  held_N_per_m = 50;  % a released arm is softer, a hand is stiffer

  inkwell_enable(arm);
  measured = zeros(0, 3);  % x, velocity along x, force along x
  is_released = ~inkwell_information(arm).is_virtual;
  pose = inkwell_pose(arm);
  begin_s = pose.time_s + catch_s;
  while pose.time_s < begin_s + duration_s
    now_s = pose.time_s - begin_s;
    target_m = centre_m + [amplitude_m * sin(2 * pi * frequency_Hz * max(now_s, 0)); 0; 0];
    inkwell_force(arm, spring_N_per_m * (target_m - pose.position_m) - damping_Ns_per_m * pose.velocity_m_s);
    if ~is_released && now_s > 0
      is_released = true;
      release_simulated_hand(arm);
    end
    if now_s > 1
      measured(end + 1, :) = [pose.position_m(1), pose.velocity_m_s(1), pose.force_N(1)];
    end
    pose = inkwell_pose(arm);
  end
  inkwell_enable(arm, false);

  moves = abs(measured(:, 2)) > 0.005;
  x_m = measured(moves, 1);
  velocity_m_s = measured(moves, 2);
  force_N = measured(moves, 3);
  terms = [sign(velocity_m_s), velocity_m_s, x_m, ones(size(x_m))];
  found = terms \ force_N;
  fit = struct('coulomb_N', found(1), 'viscous_Ns_per_m', found(2), 'stiffness_N_per_m', found(3), 'offset_N', found(4));
  if fit.stiffness_N_per_m > held_N_per_m
    error('inkwell:refused', ['A hand holds the stylus with a stiffness of %.0f N/m. Release the stylus while the spring ' ...
                              'moves it, and call the function again.'], fit.stiffness_N_per_m);
  end

  % Without the elastic part, the remaining force depends on the velocity only.
  from_velocity_N = force_N - terms(:, 3:4) * found(3:4);
  line_m_s = [min(velocity_m_s), 0, 0, max(velocity_m_s)];
  line_N = found(1) * [-1, -1, 1, 1] + found(2) * line_m_s;
  figure('visible', 'off', 'paperunits', 'inches', 'paperposition', [0 0 8 4.6]);
  plot(velocity_m_s, from_velocity_N, '.', 'color', [0.34 0.71 0.91], 'markersize', 4, ...
       line_m_s, line_N, '-', 'color', [0.84 0.37 0], 'linewidth', 2.5);
  names = {'', ' (simulation)'};
  title(['Friction of the stylus along x', names{1 + inkwell_information(arm).is_virtual}]);
  xlabel('velocity  /  (m/s)');
  ylabel('force against the movement  /  N');
  fitted = sprintf('fitted: %.2f N dry, %.1f Ns/m viscous', fit.coulomb_N, fit.viscous_Ns_per_m);
  legend({'measured, each millisecond', fitted}, 'location', 'southoutside', 'orientation', 'horizontal', 'box', 'off');
  set(gca, 'fontsize', 12, 'box', 'off', 'tickdir', 'out');
  set(gca, 'xgrid', 'on', 'ygrid', 'on', 'gridcolor', [0.9 0.9 0.9]);
  print(picture, '-dpng', '-r180');
end

function release_simulated_hand(arm)
  try
    inkwell_hand(arm);
  catch error_of
    if ~strcmp(error_of.identifier, 'inkwell:refused')  % another program controls this hand
      rethrow(error_of);
    end
  end
end
