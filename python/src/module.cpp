#include "arrays.hpp"

#include <nanobind/stl/string.h>

NB_MODULE(_core, m)
{
    // Errors of its own pass through nanobind as they are; objects that Python never frees are no reason to say so.
    nb::set_leak_warnings(false);
    m.attr("__version__") = swiftprox_library_version();
    bind_errors(m);
    bind_shape(m);
    bind_pair(m);
    bind_compound(m);
    bind_scene(m);
    m.def("dtype", &dtype, nb::arg("name"), nb::sig("def dtype(name: str) -> numpy.dtype[numpy.void]"),
          "The dtype of structured arrays: 'distance', 'pair', 'contact', 'point', 'least distance', 'ray hit', 'ground contact',\n"
          "'compound contact'.");
}
