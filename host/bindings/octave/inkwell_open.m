function arm = inkwell_open(address, seed, timeout_s)
% inkwell_open  Opens a haptic arm; its force is off.
%
%   arm = inkwell_open()           the address in INKWELL_DEVICE, otherwise the only arm on USB
%   arm = inkwell_open(address)    a serial number, a name such as 'left', 'usbip:HOST:PORT', 'usbip:unix:PATH', or
%                                  'virtual' for a simulated arm
%   arm = inkwell_open('virtual', seed)
%     A simulated arm. Its time passes only while a function waits for the arm, such as inkwell_pose, inkwell_sleep or
%     inkwell_capture. The same script with the same seed returns the same samples each time.
%   arm = inkwell_open(address, [], timeout_s)
%     Raises an error with the identifier 'inkwell:timed_out' if no pose arrives within this time, by default 60 s.
%
% Lengths are in m, forces in N, angles in rad, times in s of board time. Positions and forces are in the arm's
% workspace axes. On the Omni x points to the right, y up, z to the user. Each function raises an error that states what
% to do.
  if nargin < 1
    address = '';
  end
  if nargin > 1 && ~isempty(seed)
    if ~strcmp(address, 'virtual')
      error('inkwell:refused', 'A seed requires a simulated arm. Give the address ''virtual''.');
    end
    if ~(isnumeric(seed) && isscalar(seed))
      error('inkwell:refused', 'The seed is not valid. Give a whole number of 0 or more.');
    end
    address = sprintf('virtual?seed=%d', seed);
  end
  if exist('OCTAVE_VERSION', 'builtin') && ~isfolder(fileparts(fileparts(history_file())))
    history_save(false);  % Octave cannot create this folder, and would print an error when it exits
  end
  if nargin > 2
    arm = inkwell_mex('open', address, timeout_s);
  else
    arm = inkwell_mex('open', address);
  end
end
