function [samples, time_s, lost] = inkwell_capture(arm, names, duration_s)
% [samples, time_s, lost] = inkwell_capture(arm, names, duration_s)
%   Records these signals (a cell array of names) for `duration_s` of board time, 20 000 samples per second. `samples`
%   has a row for each control period and a column for each signal. `lost` is the number of lost samples.
  rate_Hz = 20000;
  if ~(ischar(names) || iscellstr(names)) || isempty(names)
    error('inkwell:refused', 'No signal is given. Give a name or a cell array of names. inkwell_signals() lists all names.');
  end
  if ~(isnumeric(duration_s) && isscalar(duration_s) && isfinite(duration_s) && duration_s > 0)
    error('inkwell:refused', 'The duration is not valid. Give a time of more than 0 s.');
  end
  names = cellstr(names);
  wanted = max(1, round(duration_s * rate_Hz));
  samples = zeros(wanted, numel(names));
  periods = zeros(wanted, 1);
  lost = 0;
  inkwell_mex('select', arm, names);
  selects_none = onCleanup(@() inkwell_mex('select', arm, {}));  % also after an error or Ctrl-C
  for first = 1:2000:wanted  % steps of 0.1 s, so that Ctrl-C works
    rows = first:min(first + 1999, wanted);
    [samples(rows, :), periods(rows), missing] = inkwell_mex('read', arm, numel(names), numel(rows));
    lost = lost + missing;
  end
  time_s = (periods - periods(1)) / rate_Hz;
end
