function inkwell_scene_material(arm, object, material)
% inkwell_scene_material(arm, object, material)  Changes the surface of an object. See inkwell_scene_add.
  inkwell_mex('scene_material', arm, object, material);
end
