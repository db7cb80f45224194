namespace catoptric::report {}
