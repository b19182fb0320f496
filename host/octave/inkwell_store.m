function state = inkwell_store(arm, action)
% inkwell_store(arm)                   The board keeps its parameters as they are now, over its power.
% inkwell_store(arm, 'restore')        Every parameter gets what is stored.
% inkwell_store(arm, 'factory reset')  The board forgets what is stored, the calibration too; defaults everywhere.
% state = inkwell_store(arm, 'state')  What is stored:
%
%   state.contents         'nothing', 'parameters', 'factory reset' or 'other schema'
%   state.not_stored       how many values would be lost with the board's power
%   state.stores_left      how many stores fit before the board's next start, which makes room
%   state.records_written  in the board's life
%
% The board refuses while the force is on.
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
