/* What goes to std::cerr, and nowhere where SWIFT_LEGACY_QUIET is defined. */
#ifndef SWIFT_LEGACY_MESSAGES_H
#define SWIFT_LEGACY_MESSAGES_H

#include <iostream>
#include <sstream>
#include <string>

#include "../SWIFT_config.h"

namespace swift_legacy {

inline void report(const std::string& message)
{
#ifdef SWIFT_LEGACY_QUIET
    (void)message;
#else
    std::cerr << message << std::endl;
#endif
}

/* About a call without effect, which the old libraries reported when built for debugging. */
inline void warn(const std::string& message)
{
#ifdef SWIFT_DEBUG
    report(message);
#else
    (void)message;
#endif
}

template <class Value> std::string text(const Value& value)
{
    std::ostringstream stream;
    stream << value;
    return stream.str();
}

inline void report_no_object(int id, const char* method)
{
    report("Error: Object id out of range given to " + std::string(method) + ": " + text(id));
}

/* How messages about a piece begin that a method is adding. */
inline std::string about_piece(const char* method, int object, int piece)
{
    return "Error (" + std::string(method) + " obj " + text(object) + " piece " + text(piece) + "): ";
}

} // namespace swift_legacy

#endif
