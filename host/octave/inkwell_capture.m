function [samples, time_s, lost] = inkwell_capture(arm, names, duration_s)
% [samples, time_s, lost] = inkwell_capture(arm, names, duration_s)
%   Takes these signals (a cell array of names) at every control period, 20 000 a second, for so many seconds of board
%   time. `samples` has a row for each control period and a column for each signal, `lost` counts missing ones.
  rate_Hz = 20000;
  if ~(ischar(names) || iscellstr(names)) || isempty(names)
    error('inkwell:refused', 'No signal is named. Give one name or a cell array of them; inkwell_signals() lists them.');
  end
  if ~(isnumeric(duration_s) && isscalar(duration_s) && isfinite(duration_s) && duration_s > 0)
    error('inkwell:refused', 'The duration is no time. Give seconds, a number above 0.');
  end
  names = cellstr(names);
  wanted = max(1, round(duration_s * rate_Hz));
  samples = zeros(wanted, numel(names));
  periods = zeros(wanted, 1);
  lost = 0;
  inkwell_mex('select', arm, names);
  selects_none = onCleanup(@() inkwell_mex('select', arm, {}));  % also after an error or Ctrl-C
  for first = 1:2000:wanted  % a tenth of a second each, so that Ctrl-C is heard
    rows = first:min(first + 1999, wanted);
    [samples(rows, :), periods(rows), missing] = inkwell_mex('read', arm, numel(names), numel(rows));
    lost = lost + missing;
  end
  time_s = (periods - periods(1)) / rate_Hz;
end
