function information = inkwell_information(arm)
% information = inkwell_information(arm)  Who the device is.
%
%   information.product, information.serial_number, information.firmware_version    text
%   information.board    the board that the firmware is for, such as 'omni_driver'; empty if it tells none
%   information.is_virtual    true or false: what comes from a virtual board is a simulation
  information = inkwell_mex('information', arm);
end
