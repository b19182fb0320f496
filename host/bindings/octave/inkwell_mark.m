function inkwell_mark(arm, text)
% inkwell_mark(arm, text)  Marks the newest pose in the running recording.
  inkwell_mex('mark', arm, text);
end
