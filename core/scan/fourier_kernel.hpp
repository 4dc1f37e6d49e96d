// What a Fourier transform of a plane consists of, vectorised for the processor that runs it.
//
// Columns are transformed in place by decimation in frequency: first a stage of radix 3 where the side has the factor
// 3, then stages of radix 4, and one of radix 2 where a factor 2 is left. Butterfly j of a stage of radix p that splits
// transforms of a length has the twiddle factors exp(-2 pi i j k / length), k = 1..p-1.
#pragma once

#include "core/scan/fourier.hpp"

namespace roadfix {

/// `twiddles`: of all stages but that of radix 2, first to last.
void forward_transform(const ComplexPlane& plane, Filled filled, ComplexPlane& scratch, const float* twiddles,
                       Spectrum& spectrum);
/// `twiddles` points behind the last ones.
void backward_transform_of_product(const Spectrum& a, const Spectrum& b, bool conjugate, const float* twiddles,
                                   IndexRange wanted, ComplexPlane& sums, ComplexPlane& scratch);

}  // namespace roadfix
