% Executes the commands of losses_test.py through the Octave functions.
1;

function carry_out(words)
  global arm
  switch words{1}
    case 'open'
      if arm, inkwell_close(arm); end
      arm = inkwell_open(words{2});
      inkwell_clear_fault(arm);
      inkwell_enable(arm);
    case 'enable'
      inkwell_clear_fault(arm);
      inkwell_enable(arm);
    case 'pose'
      printf('ok %.6f\n', inkwell_pose(arm).position_m(1));
      return;
    case 'push'
      for i = 1:30
        inkwell_force(arm, [str2double(words{2}) 0 0]);
        inkwell_pose(arm);
      end
    case 'close'
      inkwell_close(arm);
      arm = 0;
  end
  printf('ok\n');
end

global arm = 0;
while true
  try
    line = input('', 's');  % fgetl(stdin) would wait for the first character of the next line
  catch
    break;
  end
  try
    carry_out(strsplit(line, ' '));
  catch failure
    x_m = 0;
    try
      x_m = inkwell_last_pose(arm).position_m(1);
    end
    printf('error %.6f %s\n', x_m, failure.message);
  end
  fflush(stdout);
end
