% Tests the Octave functions on separate virtual boards. Exits with an error if a function fails.
1;

% Errors contain the library's message.
refused(@() inkwell_open('no such number'), 'no such number');

% Names of arms.
file = [tempname() '.toml'];
setenv('INKWELL_ARMS', file);
assert(isempty(inkwell_names()));
handle = fopen(file, 'w');
fputs(handle, "[[arm]]\nname = \"left\"\naddress = \"2A\"\n");
fclose(handle);
names = inkwell_names();
assert(names(1).name, 'left');
assert(names(1).address, '2A');
refused(@() inkwell_open('lefft'), 'Did you mean left? Known names: left');
refused(@() inkwell_open('Left'), 'The arm left is not plugged in');
delete(file);
setenv('INKWELL_ARMS', '');
refused(@() inkwell_pose(7), 'not open');
refused(@() inkwell_pose(0.5), 'not open');
refused(@() inkwell_mex(), 'missing');
refused(@() inkwell_mex('nonsense'), 'no such command');
refused(@() inkwell_mex('read'), 'missing');

arm = inkwell_open('virtual');
pose = inkwell_pose(arm);
assert(pose.state, 'ready');
assert(size(pose.position_m), [3 1]);
assert(pose.rotation * pose.rotation', eye(3), 1e-5);

information = inkwell_information(arm);
assert(information.is_virtual);
assert(isempty(information.serial_number), false);
assert(information.board, 'omni_driver');

% States, abilities, joint torques and claims.
state = inkwell_state(arm);
assert(state.pose.is_referenced);
assert(abs(state.received_s - time()) < 3600);
assert(norm(state.quaternion), 1, 1e-5);
assert(size(state.joint_speed_rad_per_s), [3 1]);
assert(size(state.angular_velocity_rad_per_s), [3 1]);
abilities = inkwell_abilities(arm);
assert(abilities.workspace_maximum_m(1), inkwell_parameters(arm, 'box_maximum_x_m'), 1e-6);
assert(abilities.third_joint_is_absolute);
[position_m, jacobian] = inkwell_kinematics(arm, state.pose.joint_rad);
assert(position_m, state.pose.position_m, 1e-4);
torque_Nm = jacobian' * [0.4; 0.6; -0.3];
assert(inkwell_joint_torques(arm, state.pose.joint_rad, torque_Nm), [0.4; 0.6; -0.3], 1e-4);
refused(@() inkwell_joint_torques(arm, [0 0.5 0.5 + pi / 2], torque_Nm), 'stretched');
assert(! inkwell_driver(arm).is_driven);
inkwell_claim(arm);
assert(inkwell_driver(arm).is_this_arm);
inkwell_joint_torques(arm, [0 0 0]);
inkwell_claim(arm, false);
assert(! inkwell_driver(arm).is_driven);
refused(@() inkwell_priority(arm, 100), '1 to 99');
assert(iscellstr(inkwell_devices()));
try
  inkwell_devices(0);
  error('a list that does not change was returned');
catch error_of
  assert(error_of.identifier, 'inkwell:timed_out');
end
assert(regexp(inkwell_version(), '^\d+\.\d+\.\d+$'), 1);
inkwell_close(inkwell_open('virtual', [], 60));

% Parameters: one, several, all, unknown, out of range.
assert(inkwell_parameters(arm, 'wall_stiffness_N_per_m'), 800);
inkwell_parameters(arm, {'wall_stiffness_N_per_m', 'wall_damping_Ns_per_m'}, [500 1.5]);
assert(inkwell_parameters(arm, 'wall_stiffness_N_per_m'), 500);
table = inkwell_parameters();
assert(table(strcmp({table.name}, 'force_limit_N')).unit, 'N');
refused(@() inkwell_parameters(arm, 'wall_stifness_N_per_m'), 'Did you mean wall_stiffness_N_per_m?');
refused(@() inkwell_parameters(arm, 'wall_stiffness_N_per_m', NaN), 'wall_stiffness_N_per_m');
refused(@() inkwell_parameters(arm, 'wall_stiffness_N_per_m', [1 2]), 'as many values');
inkwell_parameters(arm, {'wall_stiffness_N_per_m', 'wall_damping_Ns_per_m'}, sparse([700 0]));
assert(inkwell_parameters(arm, 'wall_damping_Ns_per_m'), 0);
inkwell_parameters(arm, {'wall_stiffness_N_per_m', 'wall_damping_Ns_per_m'}, single([500 1.5]));
assert(inkwell_parameters(arm, 'wall_damping_Ns_per_m'), 1.5);

% Text is not a number: it would count as character codes.
refused(@() inkwell_force(arm, 'abc'), 'is text. Three numbers are required');
refused(@() inkwell_hand(arm, 'abc'), 'is text. Three numbers are required');
refused(@() inkwell_hand(arm, [0 0 0], 'd'), 'not a number');
refused(@() inkwell_parameters(arm, 'wall_stiffness_N_per_m', 'd'), 'not a number');
refused(@() inkwell_enable(arm, 'n'), 'not a number');
refused(@() inkwell_sleep(arm, 'd'), 'The duration is not valid');
refused(@() inkwell_open('virtual', '7'), 'The seed is not valid');

% Stored parameters.
assert(inkwell_store(arm, 'state').not_stored, 2);
refused(@() inkwell_store(arm, 'restore'), 'no stored parameters');
inkwell_store(arm);
assert(inkwell_store(arm, 'state').contents, 'parameters');
assert(inkwell_store(arm, 'state').not_stored, 0);
assert(inkwell_store(arm, 'state').records_written, 1);
inkwell_parameters(arm, 'wall_stiffness_N_per_m', 600);
inkwell_store(arm, 'restore');
assert(inkwell_parameters(arm, 'wall_stiffness_N_per_m'), 500);
inkwell_store(arm, 'factory reset');
assert(inkwell_parameters(arm, 'wall_stiffness_N_per_m'), 800);
assert(inkwell_store(arm, 'state').contents, 'factory reset');
refused(@() inkwell_store(arm, 'nonsense'), 'no such action');

items = inkwell_self_test(arm);
assert(all(strcmp({items.result}, 'passed') | strcmp({items.result}, 'not done')));
motor = items(strcmp({items.name}, 'motor_1'));
assert(strcmp(motor.unit, 'ohm') && motor.figure > 1 && motor.takes_force);
assert(isequal(inkwell_self_test(arm, 'last'), items));
refused(@() inkwell_self_test(arm, 'nonsense'), 'no such self-test');

% The scope as a matrix.
assert(any(strcmp(inkwell_signals(), 'supply_V')));
[samples, time_s, lost] = inkwell_capture(arm, {'position_z_m', 'supply_V'}, 0.1);
assert(size(samples), [2000 2]);
assert(samples(:, 2), 18 * ones(2000, 1), 1);
assert(time_s(end), (1999 + lost) / 20000, 1e-9);
refused(@() inkwell_capture(arm, {'position_z_mm'}, 0.1), 'Did you mean position_z_m?');
for wrong = {-1, 0, NaN, Inf, 'long', [1 2]}
  refused(@() inkwell_capture(arm, {'position_x_m'}, wrong{1}), 'The duration is not valid');
end
for wrong = {{}, '', 7}
  refused(@() inkwell_capture(arm, wrong{1}, 1), 'No signal is given');
end
refused(@() inkwell_mex('read', arm, 1, 1), 'No signals are selected');

% A force pulls the hand: between springs of 300 and 100 N/m, 20 mm apart.
target_m = [0.02; 0; -0.03];
inkwell_parameters(arm, {'host_timeout_s', 'program_force_expiry_s'}, [2 0.5]);  % allows for a busy computer
inkwell_hand(arm, [0 0 -0.03]);
do
  pose = inkwell_pose(arm);
until norm(pose.position_m(1:2)) < 0.004
inkwell_enable(arm);
refused(@() inkwell_force(arm, [NaN 0 0]), 'not a finite number');
refused(@() inkwell_force(arm, [0 -Inf 0]), 'not a finite number');
refused(@() inkwell_force(arm, [1 2]), 'Three numbers');
for zero = {int32([0 0 0]), single([0; 0; 0]), sparse([0 0 0])}
  inkwell_force(arm, zero{1});
end
pose = inkwell_pose(arm);
begin_s = pose.time_s;
while abs(pose.position_m(1) - 0.005) > 0.0007 || abs(pose.velocity_m_s(1)) > 0.005
  assert(pose.time_s < begin_s + 10, 'the hand was not pulled');
  inkwell_force(arm, 100 * (target_m - pose.position_m));
  pose = inkwell_pose(arm);
end
assert(pose.force_N(1), 1.5, 0.2);
assert(! pose.limited_by_force);
assert(pose.is_referenced);
assert(pose.state, 'active');

% Force limits are reported in the pose.
function push_until(arm, force_N, condition)
  pose = inkwell_pose(arm);
  begin_s = pose.time_s;
  while ! condition(pose)
    assert(pose.time_s < begin_s + 10, 'no limit was told: %s', func2str(condition));
    inkwell_force(arm, [force_N 0 0]);
    pose = inkwell_pose(arm);
  end
end
push_until(arm, 100, @(pose) pose.limited_by_force);
push_until(arm, 0.5, @(pose) ! pose.limited_by_force && ! pose.limited_by_current);
inkwell_parameters(arm, 'current_limit_1_A', 0.02);
push_until(arm, 0.5, @(pose) pose.limited_by_current && ! pose.limited_by_force);
push_until(arm, 0, @(pose) ! pose.limited_by_current);
table = inkwell_parameters();
inkwell_parameters(arm, 'current_limit_1_A', table(strcmp({table.name}, 'current_limit_1_A')).default_value);

% With a seed, time advances only while a function waits, so a loop receives every pose and each run is the same.
function samples = run_with_seed(seed)
  arm = inkwell_open('virtual', seed);
  inkwell_force(arm, [0 0 0]);  % claims the arm
  pose = inkwell_pose(arm);
  begin_s = pose.time_s;
  for i = 1:20
    inkwell_force(arm, [0 0 0]);
    pose = inkwell_pose(arm);
  end
  servo_period_s = 50e-6;  % a pose may be one period older than its bus frame
  assert(pose.time_s - begin_s, 0.02, 1.1 * servo_period_s);
  inkwell_sleep(arm, 0.25);
  pose = inkwell_pose(arm);
  assert(pose.time_s - begin_s, 0.27, 1.1 * servo_period_s);
  samples = inkwell_capture(arm, {'supply_V', 'position_z_m'}, 0.05);
  inkwell_close(arm);
end
samples = run_with_seed(7);
assert(isequal(run_with_seed(7), samples));
assert(! isequal(run_with_seed(8), samples));
refused(@() inkwell_open('usbip:127.0.0.1:1', 7), 'A seed requires a simulated arm');

% A recording of the command line can be loaded, and its marks are text.
[programs, ~] = fileparts(fileparts(which('inkwell_mex')));
file = [tempname() '.h5'];
command = sprintf('echo touch | %s/inkwell --virtual record %s --seconds 0.2 --mark-key', programs, file);
[status, said] = system([command ' 2>&1']);
assert(status, 0, said);
recording = load(file);
delete(file);
assert(numel(recording.signals.force_N), 4000);
assert(recording.parameters.wall_stiffness_N_per_m, 800);
assert(diff(recording.time_s), ones(1, 3999) / 20000, 1e-9);
assert(strtrim(recording.marks.text), 'touch');
assert(any(recording.period == recording.marks.period));  % on a busy computer the mark comes after the first sample

% The example releases the stylus and finds the waist friction of the simulation: 0.010 Nm at the probe's lever arm.
graphics_toolkit('gnuplot');
picture = [tempname() '.png'];
found = identify_friction(arm, picture);
assert(abs(found.stiffness_N_per_m) < 20, 'stiffness_N_per_m is %g', found.stiffness_N_per_m);
assert(found.coulomb_N > 0.05 && found.coulomb_N < 0.12, 'coulomb_N is %g', found.coulomb_N);
assert(stat(picture).size > 1000);
delete(picture);

% The example refuses to identify a hand that another program controls.
ready = tempname();
fclose(fopen(ready, 'w'));
assert(system(sprintf('%s/virtual-board --elf %s/../board/inkwell.elf --real-time > %s 2> /dev/null &', ...
                      programs, programs, ready)), 0);
do
  pause(0.05);
  ports = sscanf([fileread(ready) ' '], 'ready usbip=%d control=%d\n');
until numel(ports) == 2
delete(ready);
function control(port, command)
  talk = sprintf('exec 3<>/dev/tcp/127.0.0.1/%d; echo "$1" >&3; head -n 1 <&3', port);
  [status, reply] = system(sprintf("bash -c '%s' _ '%s'", talk, command));
  assert(status == 0 && ! isempty(strfind(reply, 'true')), reply);
end
control(ports(2), '{"command": "dock", "docked": true}');
held = inkwell_open(sprintf('usbip:127.0.0.1:%d', ports(1)));
do
  pose = inkwell_pose(held);
until strcmp(pose.state, 'ready')
inkwell_parameters(held, {'host_timeout_s', 'program_force_expiry_s'}, [2 0.5]);
control(ports(2), ['{"command": "hand", "holds": true, "target_m": [0, 0, -0.03], "stiffness_N_per_m": 300, ' ...
                   '"damping_Ns_per_m": 3}']);
control(ports(2), '{"command": "dock", "docked": false}');
inkwell_sleep(held, 1);
refused(@() identify_friction(held, picture), 'A hand holds the stylus');

% The hand of a running board follows a path with its own damping, and the truth of the simulation is a structure.
refused(@() inkwell_hand(held, [0 0 -0.03]), 'connect the control socket');
refused(@() inkwell_connect_hand(held, '127.0.0.1:1'), '127.0.0.1:1');
inkwell_connect_hand(held, sprintf('127.0.0.1:%d', ports(2)));
inkwell_hand(held, [0 0 -0.03], 500, 12);
inkwell_sleep(held, 0.5);
truth = inkwell_truth(held);
assert(truth.hand_holds);
assert(truth.true_position_x_m, 0, 0.003);
refused(@() inkwell_hand_path(held, [0 0 0]), 'rows [time_s x_m y_m z_m]');
refused(@() inkwell_hand_path(held, {1, 2, 3, 4}), 'not a number');
inkwell_hand_path(held, [0 0 0 -0.03; 0.3 0.02 0 -0.03]);
inkwell_sleep(held, 0.6);
truth = inkwell_truth(held);
assert(truth.true_position_x_m, 0.02, 0.003);
assert(inkwell_pose(held).position_m(1), truth.true_position_x_m, 0.003);
inkwell_close(held);
control(ports(2), '{"command": "quit"}');

% A recording holds marks, name and note; losses are counted, and a test pulse is visible.
file = [tempname(), '.csv'];
refused(@() inkwell_mark(arm, 'early'), 'No recording is running');
pulsed = inkwell_open('virtual');
inkwell_record(pulsed, file, {'current_1_A', 'duty_1'}, 'subject 7', 'left hand');
inkwell_sleep(pulsed, 0.05);
inkwell_mark(pulsed, 'pulse');
inkwell_test_pulse(pulsed, 1, 'V', 1.5, 0.005);
inkwell_sleep(pulsed, 0.05);
[samples, lost, is_complete] = inkwell_stop_recording(pulsed);
assert(samples > 1000);
assert(is_complete, lost == 0);
content = fileread(file);
delete(file);
assert(! isempty(strfind(content, sprintf("# name = subject 7\n# note = left hand\n"))));
assert(! isempty(regexp(content, '# mark \d+ mark \S+ = pulse\n')));
assert(! isempty(regexp(content, '\n[\d.]+,[-\de.]+,0\.0[3-9]')));  % the duty of the pulse
losses = inkwell_losses(pulsed);
assert(losses.poses, 0);
assert(losses.slow_servo_calls, 0);
refused(@() inkwell_test_pulse(pulsed, 1, 'W', 1, 0.005), 'unit');
inkwell_close(pulsed);

% A program in a new home folder prints nothing when it exits.
home = tempname();
mkdir(home);
[status, said] = system(sprintf(['env -u XDG_DATA_HOME HOME=%s %s/bin/octave-cli --norc --path %s ' ...
                                 '--eval "inkwell_close(inkwell_open(''virtual''))" 2>&1'], ...
                                home, OCTAVE_EXEC_HOME, fileparts(which('inkwell_mex'))));
rmdir(home, 's');
assert(status, 0);
assert(said, '');

% A forked child cannot use its parent's arm.
parent = getpid();
child = fork();
if child == 0
  is_refused = false;
  try
    inkwell_pose(arm);
  catch error_of
    is_refused = ! isempty(strfind(error_of.message, sprintf('opened by process %d', parent)));
  end
  inkwell_close(arm);
  exit(! is_refused);
end
[~, status] = waitpid(child);
assert(WIFEXITED(status) && WEXITSTATUS(status) == 0);
assert(inkwell_pose(arm).time_s > pose.time_s);
assert(inkwell_last_pose(arm).time_s > pose.time_s);

inkwell_close(arm);
refused(@() inkwell_close(arm), 'not open');
