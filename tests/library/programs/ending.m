% Counterpart of ending.cpp for the Octave functions: ending.m COMMAND close|exit|kill|wait
sigterm_dumps_octave_core(false);  % the test ends a waiting program with SIGTERM
arguments = argv();
[command, ending] = arguments{end-1:end};
arm = inkwell_open();
switch command
  case 'stop'
    inkwell_stop(arm);
  case 'disable'
    inkwell_enable(arm);
    inkwell_enable(arm, false);
  case 'clear'
    inkwell_clear_fault(arm);
  case 'set'
    inkwell_parameters(arm, 'wall_stiffness_N_per_m', 777);
  case 'store'
    inkwell_store(arm);
end
if strcmp(ending, 'close')
  inkwell_close(arm);
end
printf('returned\n');
fflush(stdout);
if strcmp(ending, 'kill')
  kill(getpid(), 9);
elseif strcmp(ending, 'wait')
  pause(1000);
end
exit(0);
