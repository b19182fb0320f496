// Stand-in for the header of pluginlib: checks only that the class can be created as its base class.
#pragma once

#include <type_traits>

#define PLUGINLIB_EXPORT_CLASS(Class, Base) \
  static_assert(std::is_base_of_v<Base, Class> && std::is_default_constructible_v<Class>);
