function inkwell_clear_fault(arm)
% inkwell_clear_fault(arm)  Clears a fault of the board. If the cause is still present, the function raises an error
%                           with the remedy.
  inkwell_mex('clear_fault', arm);
end
