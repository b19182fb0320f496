function names = inkwell_names()
% names = inkwell_names()  Names of arms, such as 'left', as a structure array with the fields name and address.
%   inkwell_open accepts each name. The command `inkwell arms bind` adds names.
  names = inkwell_mex('names');
end
