# Fails on Doxygen's warnings, but for members that have no description.
file(STRINGS ${WARNINGS} warnings)
list(FILTER warnings EXCLUDE REGEX "Member .* of (struct|class) .* is not documented")
if(warnings)
  list(JOIN warnings "\n" text)
  message(FATAL_ERROR "the reference has warnings:\n${text}")
endif()
