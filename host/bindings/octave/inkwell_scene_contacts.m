function contacts = inkwell_scene_contacts(arm)
% contacts = inkwell_scene_contacts(arm)  The present contacts, at most three: a structure array.
%
%   contacts(1).object    number of the object
%   contacts(1).triangle  row of the faces of a mesh; 1 for other objects
%   contacts(1).point_m   on the surface, 3 x 1
%   contacts(1).normal    unit vector to the tip, 3 x 1
%   contacts(1).depth_m   depth of the hand below the surface
%   contacts(1).time_s    board time
  contacts = inkwell_mex('scene_contacts', arm);
end
