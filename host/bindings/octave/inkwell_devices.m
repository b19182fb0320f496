function addresses = inkwell_devices(timeout_s)
% addresses = inkwell_devices()           Addresses of the arms that can be opened, as a cell array.
% addresses = inkwell_devices(timeout_s)  Waits until an arm is plugged in or removed, at most for this time.
  if nargin < 1
    addresses = inkwell_mex('devices');
  else
    addresses = inkwell_mex('devices', timeout_s);
  end
end
