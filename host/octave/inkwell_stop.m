function inkwell_stop(arm)
% inkwell_stop(arm)  Takes the force away at once, whichever program drives the arm, and returns once it is off.
  inkwell_mex('stop', arm);
end
