function inkwell_scene_move(arm, object, varargin)
% inkwell_scene_move(arm, object, position_m, quaternion, velocity_m_per_s, angular_velocity_rad_per_s)
%   Moves an object. The last three arguments are optional, and [] means 0. From then on, the object moves with these
%   velocities for at most 20 ms. To move an object evenly, call this function each frame with its velocity.
  inkwell_mex('scene_move', arm, object, varargin{:});
end
