function inkwell_test_pulse(arm, motor, unit, amplitude, duration_s)
% inkwell_test_pulse(arm, motor, unit, amplitude, duration_s)
%   Sends one pulse of 0 to 0.1 s to motor 1, 2 or 3 in the state 'ready'. The unit is 'V', a voltage with the current
%   loop off, or 'A', a current. The arm then rests for the same time. Record the pulse with inkwell_record.
  inkwell_mex('test_pulse', arm, motor, unit, amplitude, duration_s);
end
