function driver = inkwell_driver(arm)
% driver = inkwell_driver(arm)  The program that drives the arm.
%
%   driver.is_driven      false: no program drives the arm, and the rest is empty or 0
%   driver.is_this_arm    true: it is driven through this arm
%   driver.program        its name
%   driver.process_id     on its computer
%   driver.driven_s       board time since it claimed the arm, s
  driver = inkwell_mex('driver', arm);
end
