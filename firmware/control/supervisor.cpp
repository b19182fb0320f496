#include <control/supervisor.hpp>
