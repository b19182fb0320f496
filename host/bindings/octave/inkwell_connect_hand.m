function inkwell_connect_hand(arm, control)
% inkwell_connect_hand(arm, control)  Connects the simulated hand of a virtual board that was opened as 'usbip:...'.
%   `control` is the address of the board's control socket, 'HOST:PORT' or 'unix:PATH'.
  inkwell_mex('connect_hand', arm, control);
end
