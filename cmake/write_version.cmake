# Writes VERSION_HEADER with the project's version, the commit it is built from, compiler and options; touched only when they change.
execute_process(
  COMMAND git -C ${SOURCE_DIR} describe --always --dirty --abbrev=12
  OUTPUT_VARIABLE commit
  OUTPUT_STRIP_TRAILING_WHITESPACE
  ERROR_QUIET)
if(NOT commit)
  set(commit "unknown")
endif()
configure_file(${SOURCE_DIR}/src/base/version.h.in ${VERSION_HEADER} @ONLY)
