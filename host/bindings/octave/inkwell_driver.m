function driver = inkwell_driver(arm)
% driver = inkwell_driver(arm)  The program that drives the arm.
%
%   driver.is_driven      false: no program drives the arm, and the other fields are empty or 0
%   driver.is_this_arm    true: the arm is driven through this handle
%   driver.program        name of the program
%   driver.process_id     process number on the driver's computer
%   driver.driven_s       board time since the driver claimed the arm, s
  driver = inkwell_mex('driver', arm);
end
