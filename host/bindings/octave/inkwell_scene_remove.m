function inkwell_scene_remove(arm, varargin)
% inkwell_scene_remove(arm, object)  Removes an object.
% inkwell_scene_remove(arm)          Removes all objects.
  inkwell_mex('scene_remove', arm, varargin{:});
end
