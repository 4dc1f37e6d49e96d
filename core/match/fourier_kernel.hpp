// What a Fourier transform of a plane consists of, vectorised for the processor that runs it.
//
// Columns are transformed in place by decimation in frequency: a stage splits transforms of a length into as many of a
// part of it. The first stage is of three parts where the side has the factor 3, then come stages of four, and one of
// two where a factor 2 is left. A stage of p parts has for its butterfly j the turns exp(-2 pi i j k / length), k
// = 1..p-1.
#pragma once

#include "core/match/fourier.hpp"

namespace roadfix {

/// `turns`: of all stages with turns, first to last.
void forward_transform(const ComplexPlane& plane, Filled filled, ComplexPlane& scratch, const float* turns,
                       Spectrum& spectrum);
/// `turns` points behind the last ones.
void backward_transform_of_product(const Spectrum& a, const Spectrum& b, bool conjugate, const float* turns,
                                   Columns wanted, ComplexPlane& sums, ComplexPlane& scratch);

}  // namespace roadfix
