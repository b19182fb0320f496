# Adds the public headers of the current folder to the file set of the library `target`. The test of
# docs/architecture.md refuses includes of private headers. Without a call of this function, all headers of a folder are
# public.
function(inkwell_publish_headers target)
  target_sources(${target} INTERFACE FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${ARGN})
endfunction()
