function result = inkwell_parameters(arm, names, values)
% inkwell_parameters                      Returns all parameters with unit, range and help as a struct array.
% inkwell_parameters(arm, name)           Returns the value of a parameter.
% inkwell_parameters(arm, name, value)    Sets a parameter.
% inkwell_parameters(arm, names, values)  Sets several parameters in one control period. `names` is a cell array.
  if nargin < 2
    result = inkwell_mex('parameters');
  elseif nargin < 3
    result = inkwell_mex('get', arm, names);
  else
    inkwell_mex('set', arm, names, values);
  end
end
