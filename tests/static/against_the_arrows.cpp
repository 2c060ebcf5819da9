// A file of the machine's room. Case 0 includes a header of its own; case 1 one of the simulation, against the arrows.
#include "firmware/machine/model/machine.hpp"
#if STICTION_CASE == 1
#include "sim/plant/friction/friction.hpp"
#endif
