function state = inkwell_store(arm, action)
% inkwell_store(arm)                   Stores the current parameters on the board, so that they survive power loss.
% inkwell_store(arm, 'restore')        Sets every parameter to its stored value.
% inkwell_store(arm, 'factory reset')  Erases the stored parameters and the calibration, and sets all defaults.
% state = inkwell_store(arm, 'state')  Returns the state of the store:
%
%   state.contents         'nothing', 'parameters', 'factory reset' or 'other schema'
%   state.not_stored       number of values that are lost at power loss
%   state.stores_left      number of stores that fit before the board's next start, which frees space
%   state.records_written  records since the board was made
%
% The board refuses to store or erase while the force is on.
  if nargin < 2
    action = 'store';
  end
  switch action
    case 'store'
      inkwell_mex('store', arm);
    case 'restore'
      inkwell_mex('restore', arm);
    case 'factory reset'
      inkwell_mex('factory_reset', arm);
    case 'state'
      state = inkwell_mex('store_state', arm);
    otherwise
      error('inkwell:refused', 'There is no such action. Give ''restore'', ''factory reset'', ''state'' or none.');
  end
end
