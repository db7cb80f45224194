namespace catoptric::design {}
