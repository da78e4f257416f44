#include <box2d/b2_timer.h>

// Replaces the timer of Box2D by empty functions, in programs that link this file. b2World::Step
// reads the clock about ten times for a profile that is not used here, which costs an eighth of the
// time of a generation. Box2D has no switch for this, but the dynamic linker prefers these
// definitions. The members are those of Linux and macOS.
b2Timer::b2Timer() : m_start_sec(0), m_start_usec(0) {}
void b2Timer::Reset() {}
float b2Timer::GetMilliseconds() const { return 0.0f; }
