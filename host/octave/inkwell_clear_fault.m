function inkwell_clear_fault(arm)
% inkwell_clear_fault(arm)  Clears a fault of the board. If its cause is still there, it is an error with the remedy.
  inkwell_mex('clear_fault', arm);
end
