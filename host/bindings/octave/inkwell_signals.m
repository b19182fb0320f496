function names = inkwell_signals()
% inkwell_signals  Returns the names of the signals that inkwell_capture can record, a cell array.
  names = inkwell_mex('signals');
end
