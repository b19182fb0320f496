function arm = inkwell_open(address, seed)
% inkwell_open  Opens a haptic arm; its force is off.
%
%   arm = inkwell_open()           what the environment's INKWELL_DEVICE says, else the only arm on USB
%   arm = inkwell_open(address)    a serial number, 'usbip:HOST:PORT', 'usbip:unix:PATH', or 'virtual' for a simulated one
%   arm = inkwell_open('virtual', seed)
%     A simulated arm whose time passes only while a function waits for it: inkwell_pose, inkwell_sleep, inkwell_capture
%     and others. The same script with the same seed gives the same samples each time.
%
% Lengths are in m, forces in N, angles in rad, times in s of the board; positions and forces are in the arm's
% workspace, on the Omni x to the right, y up, z to the user. Whatever goes wrong is an error that says what to do.
  if nargin < 1
    address = '';
  end
  if nargin > 1
    if ~strcmp(address, 'virtual')
      error('inkwell:refused', 'A seed is for a simulated arm. Give the address ''virtual''.');
    end
    address = sprintf('virtual?seed=%d', seed);
  end
  arm = inkwell_mex('open', address);
end
