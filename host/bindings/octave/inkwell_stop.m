function inkwell_stop(arm)
% inkwell_stop(arm)  Switches the force off immediately, whichever program drives the arm. Returns when the force
%                    is off.
  inkwell_mex('stop', arm);
end
