function [samples, lost, is_complete] = inkwell_stop_recording(arm)
% [samples, lost, is_complete] = inkwell_stop_recording(arm)
%   Completes the file of inkwell_record. `is_complete` is true if nothing is missing.
  [samples, lost, is_complete] = inkwell_mex('stop_recording', arm);
end
