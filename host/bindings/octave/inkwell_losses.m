function losses = inkwell_losses(arm)
% losses = inkwell_losses(arm)  Losses since the arm was opened.
%
%   losses.poses                  poses that the board has sent and this program has not received
%   losses.poses_missed_by_servo  poses that arrived while a servo was still being called; 0 in Octave
%   losses.slow_servo_calls, losses.longest_servo_call_s
  losses = inkwell_mex('losses', arm);
end
