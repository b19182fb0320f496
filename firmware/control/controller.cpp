#include <control/controller.hpp>
