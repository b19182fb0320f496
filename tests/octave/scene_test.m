% Tests scenes in Octave on a virtual board. Exits with an error if a function fails.
1;

function force_N = press(arm)
  inkwell_hand(arm, [0 0 -0.042]);
  inkwell_sleep(arm, 0.4);
  force_N = inkwell_pose(arm).force_N(3);
end

function lift(arm)
  inkwell_scene_remove(arm);
  inkwell_hand(arm, [0 0 -0.03]);
  inkwell_sleep(arm, 0.3);
  inkwell_scene_events(arm);
end

arm = inkwell_open('virtual', 1);
inkwell_parameters(arm, {'host_timeout_s', 'program_force_expiry_s'}, [2 0.5]);
lift(arm);
inkwell_enable(arm);

% A cube from matrices. The tip has a radius of 5 mm, and springs of 300 and 1000 N/m have rest positions 7 mm apart.
pressed_N = 0.007 * 300 * 1000 / 1300;
vertices_m = 0.02 * [-1 -1 -1; -1 -1 1; -1 1 -1; -1 1 1; 1 -1 -1; 1 -1 1; 1 1 -1; 1 1 1];
faces = [1 2 4; 1 4 3; 5 7 8; 5 8 6; 1 5 6; 1 6 2; 3 4 8; 3 8 7; 1 3 7; 1 7 5; 2 6 8; 2 8 4];
cube = inkwell_scene_add(arm, vertices_m, faces, 'wood', [0 0 -0.06]);
assert(press(arm), pressed_N, 0.15);
contact = inkwell_scene_contacts(arm);
assert(numel(contact), 1);
assert(contact.object, cube);
assert(any(contact.triangle == [11 12]));
assert(contact.normal, [0; 0; 1], 1e-3);
assert(contact.point_m(3), -0.04, 1e-4);
assert(contact.depth_m, pressed_N / 1000, 2e-4);
[events, lost] = inkwell_scene_events(arm);
assert(lost, 0);
assert({events.kind}, {'touched'});
assert(events(1).contact.object, cube);
assert(isempty(inkwell_scene_events(arm)));
inkwell_scene_material(arm, cube, struct('stiffness_N_per_m', 100, 'damping_Ns_per_m', 2));
inkwell_sleep(arm, 0.3);
assert(inkwell_pose(arm).force_N(3), 0.007 * 300 * 100 / 400, 0.15);
inkwell_scene_move(arm, cube, [0 0 -0.1], [0 0 0 1], [0 0 -0.01]);
inkwell_sleep(arm, 0.1);
assert(inkwell_pose(arm).force_N(3), 0, 1e-6);
assert(isempty(inkwell_scene_contacts(arm)));
inkwell_scene_remove(arm, cube);
refused(@() inkwell_scene_remove(arm, cube), 'does not contain object');
refused(@() inkwell_scene_move(arm, -1, [0 0 0]), 'does not contain object 0');

% Each primitive has its top at z = -0.04.
for each = {{'sphere', 0.02, -0.06}, {'capsule', [0.02 0.005], -0.065}, {'cylinder', [0.02 0.02], -0.06}, ...
            {'box', [0.02 0.02 0.02], -0.06}, {'half-space', [], -0.04}}
  lift(arm);
  inkwell_scene_add(arm, each{1}{1}, each{1}{2}, 'wood', [0 0 each{1}{3}]);
  assert(press(arm), pressed_N, 0.2);
end

% Bad input is refused and not felt.
lift(arm);
refused(@() inkwell_scene_add(arm, 'ball', 1), 'The shape ball does not exist');
refused(@() inkwell_scene_add(arm, 'sphere', [1 2]), 'The size is not valid. Give 1 numbers');
refused(@() inkwell_scene_add(arm, 'sphere', 0), 'A size of the object is 0 m');
refused(@() inkwell_scene_add(arm, 'sphere', 0.01, 'soap'), 'The material soap does not exist');
refused(@() inkwell_scene_add(arm, 'sphere', 0.01, struct('color', 1)), 'no property color');
refused(@() inkwell_scene_add(arm, 'sphere', 0.01, [], [0 0]), 'The position is not valid');
refused(@() inkwell_scene_add(arm, 'sphere', 0.01, [], [0 0 NaN]), 'A coordinate of the object');
refused(@() inkwell_scene_add(arm, vertices_m(:, 1:2), faces), 'three columns');
refused(@() inkwell_scene_add(arm, NaN * vertices_m, faces), 'A coordinate of vertex 0 is nan');
refused(@() inkwell_scene_add(arm, vertices_m, faces - 1), 'Count the rows from 1');
refused(@() inkwell_scene_add(arm, vertices_m, faces + 0.5), 'Count the rows from 1');
refused(@() inkwell_scene_add(arm, vertices_m, faces + 1), 'Triangle 2 has the vertex 8');
refused(@() inkwell_scene_add(arm, vertices_m, zeros(0, 3)), 'The mesh is empty');
refused(@() inkwell_scene_add(arm, 'sphere'), 'The shape is incomplete');
assert(press(arm), 0, 1e-6);

% The examples: the hand presses a ball of triangles, and is pushed by a moving ball.
lift(arm);
inkwell_hand(arm, [0.03 0 -0.03]);
inkwell_sleep(arm, 0.3);
inkwell_hand_path(arm, [0.1 0.03 0 -0.03; 0.3 0.022 0 -0.03]);
triangles = feel_mesh(arm, 0.6);
assert(! isempty(triangles) && all(triangles > 0));
inkwell_hand(arm, [0.025 0 -0.03]);
inkwell_sleep(arm, 0.3);
assert(feel_moving_ball(arm, 2.5) > 0.005);
inkwell_close(arm);

for each = {'feel_mesh', 'feel_moving_ball'}
  assert(sum(fileread(which(each{1})) == "\n") < 60);
end
