#include <control/trigonometry.hpp>
