function object = inkwell_scene_add(arm, what, size_m, material, varargin)
% object = inkwell_scene_add(arm, vertices_m, faces)   Adds a mesh and returns its number. The hand feels objects while
%                                                      the force is on. Each row of `faces` has the rows of three
%                                                      vertices, counter-clockwise as seen from outside.
% object = inkwell_scene_add(arm, shape, size_m)       Adds a 'sphere' (radius), 'capsule' or 'cylinder' along z
%                                                      ([radius, half length]), 'box' (half lengths) or 'half-space'
%                                                      (below z = 0; size []).
% inkwell_scene_add(..., material, position_m, quaternion)
%                                                      Material: wood, rubber, glass, steel, stone, ice, skin, sponge,
%                                                      smooth, or a structure with stiffness_N_per_m,
%                                                      damping_Ns_per_m, static_friction, dynamic_friction and
%                                                      viscosity_Ns_per_m. [] selects the default. The quaternion is
%                                                      x, y, z, w.
%
% The tip is a sphere with the radius sphere_radius_m, at least 0.5 mm. A scene has at most 64 objects with 16 different
% materials.
  if nargin < 3
    error('inkwell:refused', 'The shape is incomplete. Give vertices and faces, or a shape and its size.');
  end
  if nargin < 4
    material = [];
  end
  object = inkwell_mex('scene_add', arm, what, size_m, material, varargin{:});
end
