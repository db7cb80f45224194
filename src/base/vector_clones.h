#pragma once

/// Put before a function whose loops run over several rays or photons at a time: the compiler makes one copy
/// of it for each kind of processor, and the program takes the widest that the machine has when it starts.
/// All copies do the same operations in the same order (no contraction, no fast-math), so they give the same
/// bits. Sanitizers cannot bear the choice at program start; they get the plain copy.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define CATOPTRIC_VECTOR_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CATOPTRIC_VECTOR_CLONES
#endif
