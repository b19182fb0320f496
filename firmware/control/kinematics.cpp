#include <control/kinematics.hpp>
