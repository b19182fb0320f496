function items = inkwell_self_test(arm, which)
% items = inkwell_self_test(arm)          Tests motors, bridges, sensors and wires with small pulses.
% items = inkwell_self_test(arm, 'last')  Returns the results of the last test, without a new test.
%
%   items(i).name, .meaning  the item, and the condition that the test checks
%   items(i).result          'passed', 'failed', 'not done', 'moved', 'no part', 'broken off', 'missing',
%                            'unknown motor' or 'wrong sign'
%   items(i).figure, .unit   the measured value; unit is empty if the item has no figure
%   items(i).takes_force     whether a failure disables the force
%   items(i).remedy          what to do if it fails
%
% The board refuses the test while the force is on.
  only_last = nargin > 1;
  if only_last && ~strcmp(which, 'last')
    error('inkwell:refused', 'There is no such self-test. Give ''last'' or nothing.');
  end
  items = inkwell_mex('self_test', arm, only_last);
end
