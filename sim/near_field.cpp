#include "sim/near_field.h"
