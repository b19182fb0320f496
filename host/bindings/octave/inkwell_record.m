function inkwell_record(arm, file, names, name, note)
% inkwell_record(arm, file, names)
% inkwell_record(arm, file, names, name, note)
%   Records these signals (a cell array of names) to a new file, .h5 or .csv, until inkwell_stop_recording(arm). The file
%   also holds name, note, marks, buttons, force sources, shapes, faults, losses and parameter changes.
  if nargin < 4
    name = '';
  end
  if nargin < 5
    note = '';
  end
  inkwell_mex('record', arm, file, names, name, note);
end
