function result = inkwell_parameters(arm, names, values)
% inkwell_parameters                      All parameters with unit, range and help, a struct array.
% inkwell_parameters(arm, name)           The value of one.
% inkwell_parameters(arm, name, value)    Sets one.
% inkwell_parameters(arm, names, values)  Sets several, a cell array of names, at one control period.
  if nargin < 2
    result = inkwell_mex('parameters');
  elseif nargin < 3
    result = inkwell_mex('get', arm, names);
  else
    inkwell_mex('set', arm, names, double(values));
  end
end
