function items = inkwell_self_test(arm, which)
% items = inkwell_self_test(arm)          The board tests motors, bridges, sensors and wires, by small pulses.
% items = inkwell_self_test(arm, 'last')  What the newest test has found, without a new one.
%
%   items(i).name, .meaning  the item, and what it means if it passes
%   items(i).result          'passed', 'failed', 'not done', 'moved', 'no part' or 'broken off'
%   items(i).figure, .unit   what was measured; unit is empty if the item has no figure
%   items(i).takes_force     whether a failure takes the force away
%   items(i).remedy          what to do if it fails
%
% The board refuses while the force is on.
  only_last = nargin > 1;
  if only_last && ~strcmp(which, 'last')
    error('inkwell:refused', 'There is no such self-test. Give ''last'' or nothing.');
  end
  items = inkwell_mex('self_test', arm, double(only_last));
end
