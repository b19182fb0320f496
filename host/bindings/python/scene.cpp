#include "host/bindings/python/scene.hpp"

#include <algorithm>
#include <tuple>

#include <pybind11/stl.h>

#include "host/bindings/python/record.hpp"
#include "host/bindings/python/value.hpp"

namespace inkwell::python {
namespace {

inkwell_surface surface_of(const py::handle& shape) {
  return {shape.attr("stiffness_N_per_m").cast<double>(), shape.attr("damping_Ns_per_m").cast<double>(),
          shape.attr("static_friction").cast<double>(), shape.attr("dynamic_friction").cast<double>(),
          shape.attr("life_s").cast<double>()};
}

template <std::size_t size>
void put(const std::array<double, size>& from, double (&to)[size]) {
  std::copy(from.begin(), from.end(), to);
}

template <std::size_t size>
void put(const py::handle& from, double (&to)[size]) {
  put(from.cast<std::array<double, size>>(), to);
}

inkwell_number number_type(const py::array& array) {
  const auto has_type = [&](const py::dtype& type) { return array.dtype().equal(type); };
  if (has_type(py::dtype::of<float>())) return INKWELL_FLOAT32;
  if (has_type(py::dtype::of<double>())) return INKWELL_FLOAT64;
  if (has_type(py::dtype::of<std::int32_t>())) return INKWELL_INT32;
  if (has_type(py::dtype::of<std::uint32_t>())) return INKWELL_UINT32;
  if (has_type(py::dtype::of<std::int64_t>())) return INKWELL_INT64;
  if (has_type(py::dtype::of<std::uint64_t>())) return INKWELL_UINT64;
  throw py::type_error("An array of the mesh has an unknown type of numbers.");
}

inkwell_placement placement_of(const PlacementTuple& given) {
  inkwell_placement placement{};
  put(std::get<0>(given), placement.position_m);
  put(std::get<1>(given), placement.quaternion);
  put(std::get<2>(given), placement.velocity_m_per_s);
  put(std::get<3>(given), placement.angular_velocity_rad_per_s);
  return placement;
}

inkwell_material material_of(const MaterialTuple& given) { return {given[0], given[1], given[2], given[3], given[4]}; }

MaterialTuple find_material(const std::string& name) {
  inkwell_material found{};
  call([&] { return inkwell_find_material(name.c_str(), &found); });
  return {found.stiffness_N_per_m, found.damping_Ns_per_m, found.static_friction, found.dynamic_friction,
          found.viscosity_Ns_per_m};
}

}  // namespace

void place_shapes(Arm& arm, const py::list& planes, const py::list& solids) {
  std::vector<inkwell_plane> flat;
  std::vector<double> viscosities;
  for (const auto& plane : planes) {
    inkwell_plane next{};
    put(plane.attr("point_m"), next.point_m);
    put(plane.attr("normal"), next.normal);
    next.surface = surface_of(plane);
    flat.push_back(next);
    viscosities.push_back(plane.attr("viscosity_Ns_per_m").cast<double>());
  }
  std::vector<inkwell_solid> round;
  for (const auto& solid : solids) {
    inkwell_solid next{};
    next.shape = static_cast<inkwell_shape>(solid.attr("_shape").cast<int>());
    put(solid.attr("centre_m"), next.centre_m);
    put(solid.attr("quaternion"), next.quaternion);
    put(solid.attr("_size_m"), next.size_m);
    next.surface = surface_of(solid);
    next.viscosity_Ns_per_m = solid.attr("viscosity_Ns_per_m").cast<double>();
    round.push_back(next);
  }
  arm.place_shapes({flat.data(), flat.size(), viscosities.data(), round.data(), round.size(), sizeof(inkwell_solid)});
}

std::uint32_t scene_add(Arm& arm, int shape, const Vector& size_m, const py::object& vertices,
                        const py::object& triangles, const PlacementTuple& placement, const MaterialTuple& material,
                        bool is_smooth) {
  inkwell_object object{};
  object.shape = static_cast<inkwell_shape>(shape);
  put(size_m, object.size_m);
  object.placement = placement_of(placement);
  object.material = material_of(material);
  object.is_smooth = is_smooth ? 1 : 0;
  if (!vertices.is_none()) {
    const auto points = vertices.cast<py::array>(), corners = triangles.cast<py::array>();
    object.mesh = {points.data(),  number_type(points),  static_cast<std::size_t>(points.shape(0)),
                   corners.data(), number_type(corners), static_cast<std::size_t>(corners.shape(0))};
  }
  std::uint32_t number = 0;
  arm.use([&](inkwell_arm* opened) { return inkwell_scene_add(opened, &object, sizeof object, &number); });
  return number;
}

void scene_move(Arm& arm, std::uint32_t number, const PlacementTuple& placement) {
  const inkwell_placement moved = placement_of(placement);
  arm.use([&](inkwell_arm* opened) { return inkwell_scene_move(opened, number, &moved); });
}

void scene_set_material(Arm& arm, std::uint32_t number, const MaterialTuple& material) {
  const inkwell_material changed = material_of(material);
  arm.use([&](inkwell_arm* opened) { return inkwell_scene_set_material(opened, number, &changed); });
}

void scene_remove(Arm& arm, std::uint32_t number) {
  arm.use([&](inkwell_arm* opened) { return inkwell_scene_remove(opened, number); });
}

void scene_clear(Arm& arm) { arm.use(inkwell_scene_clear); }

std::vector<inkwell_contact> scene_contacts(Arm& arm) {
  std::vector<inkwell_contact> contacts(INKWELL_CONTACTS_MAXIMUM);
  std::size_t count = 0;
  arm.use([&](inkwell_arm* opened) {
    return inkwell_scene_get_contacts(opened, contacts.data(), sizeof(inkwell_contact), contacts.size(), &count);
  });
  contacts.resize(std::min(count, contacts.size()));
  return contacts;
}

std::pair<std::vector<inkwell_event>, std::uint64_t> scene_events(Arm& arm) {
  std::vector<inkwell_event> events(1024);
  std::size_t count = 0;
  std::uint64_t lost = 0;
  arm.use([&](inkwell_arm* opened) {
    return inkwell_scene_read_events(opened, events.data(), sizeof(inkwell_event), events.size(), &count, &lost);
  });
  events.resize(count);
  return {events, lost};
}

void define_scene(py::module_& module) {
  using Contact = inkwell_contact;
  using Event = inkwell_event;
  py::class_<Contact> contact_type(module, "Contact", "A part of an object that the tip touches.");
  make_value(contact_type, &Contact::object, &Contact::triangle, &Contact::point_m, &Contact::normal, &Contact::depth_m,
             &Contact::time_s);
  contact_type.def_readonly("object", &Contact::object, "number of the object; 0: none")
      .def_readonly("triangle", &Contact::triangle, "row of the faces of a mesh; 0 for other objects")
      .def_property_readonly("point_m", array_of(&Contact::point_m), "on the surface, m; shape (3,)")
      .def_property_readonly("normal", array_of(&Contact::normal), "unit vector to the tip; shape (3,)")
      .def_readonly("depth_m", &Contact::depth_m, "depth of the hand below the surface, m")
      .def_readonly("time_s", &Contact::time_s, "board time, s")
      .def("__repr__", [](const py::object& self) {
        return describe_attributes(self, {"object", "triangle", "point_m", "normal", "depth_m", "time_s"});
      });
  py::enum_<inkwell_event_kind> kind(module, "EventKind", "Kind of an event of a scene.");
  reduce_to_state(kind);
  kind.value("TOUCHED", INKWELL_TOUCHED, "the tip touches an object")
      .value("LEFT", INKWELL_LEFT, "the tip has not touched the object for 5 ms")
      .value("PRESSED", INKWELL_PRESSED, "a button was pressed")
      .value("RELEASED", INKWELL_RELEASED, "a button was released");
  py::class_<Event> event_type(module, "Event", "A touch, or a change of a button.");
  make_value(event_type, &Event::kind, &Event::button, &Event::time_s, &Event::contact);
  event_type.def_readonly("kind", &Event::kind)
      .def_readonly("button", &Event::button, "1 or 2 for a button, otherwise 0")
      .def_readonly("time_s", &Event::time_s, "board time, s")
      .def_readonly("contact", &Event::contact, "the first of a touch, otherwise the last; object 0: none")
      .def("__repr__", [](const py::object& self) {
        return describe_attributes(self, {"kind", "button", "time_s", "contact"});
      });
  module.def("find_material", &find_material);
}

}  // namespace inkwell::python
