function information = inkwell_information(arm)
% information = inkwell_information(arm)  Returns the identity of the device.
%
%   information.product, information.serial_number, information.firmware_version    text
%   information.board    the board that the firmware was built for, such as 'omni_driver'; empty if it is not reported
%   information.is_virtual    true for a virtual board, which is a simulation
  information = inkwell_mex('information', arm);
end
