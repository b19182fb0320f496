function version = inkwell_version()
% version = inkwell_version()  Version of the library, for example '0.2.0'.
  version = inkwell_mex('version');
end
