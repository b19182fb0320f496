function names = inkwell_signals()
% inkwell_signals  The names of the signals that inkwell_capture can take, a cell array.
  names = inkwell_mex('signals');
end
