#include "optim/hooke_jeeves.h"
