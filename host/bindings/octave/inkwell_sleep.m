function inkwell_sleep(arm, duration_s)
% inkwell_sleep(arm, duration_s)  Waits until this board time has passed. Use it instead of pause(): the time of a
%                                 simulated arm differs from the computer's clock.
  if ~(isnumeric(duration_s) && isscalar(duration_s) && duration_s >= 0)
    error('inkwell:refused', 'The duration is not valid. Give a time of 0 s or more.');
  end
  step_s = 0.1;  % so that Ctrl-C works
  while duration_s > 0
    inkwell_mex('sleep', arm, min(duration_s, step_s));
    duration_s = duration_s - step_s;
  end
end
