function touched = feel_mesh(arm, duration_s)
% touched = feel_mesh(arm, duration_s)  A ball of triangles in the middle of the box. Returns the touched triangles.
  radius_m = 0.02;
  around = 48;
  rings = 24;
  [turn_rad, height_rad] = ndgrid(2 * pi * (0:around - 1) / around, pi * (1:rings - 1) / rings);
  vertices_m = radius_m * [sin(height_rad(:)) .* cos(turn_rad(:)), sin(height_rad(:)) .* sin(turn_rad(:)), ...
                           cos(height_rad(:)); 0 0 1; 0 0 -1];
  top = size(vertices_m, 1) - 1;
  bottom = top + 1;
  last_ring = around * (rings - 2);
  faces = zeros(0, 3);
  for this = 1:around
    next = mod(this, around) + 1;
    faces(end + 1, :) = [top, this, next];
    for upper = 0:around:last_ring - 1
      faces(end + 1, :) = upper + [this, around + this, around + next];
      faces(end + 1, :) = upper + [this, around + next, next];
    end
    faces(end + 1, :) = [bottom, last_ring + next, last_ring + this];
  end

  ball = inkwell_scene_add(arm, vertices_m, faces, 'wood', [0 0 -0.03]);
  inkwell_enable(arm);
  inkwell_sleep(arm, duration_s);
  events = inkwell_scene_events(arm);
  contacts = [events(strcmp({events.kind}, 'touched')).contact];
  touched = [];
  if ~isempty(contacts)
    touched = [contacts.triangle];
  end
  inkwell_scene_remove(arm, ball);
end
