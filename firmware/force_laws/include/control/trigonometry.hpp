// For force laws: #include <control/trigonometry.hpp>.
#pragma once

#include "firmware/control/signal_path/trigonometry.hpp"
