# Names the headers of the current folder that other folders may include, as a file set of the library `target`. The test
# of docs/architecture.md refuses other includes of this folder. In a folder without this call, all headers are public.
function(inkwell_publish_headers target)
  target_sources(${target} INTERFACE FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${ARGN})
endfunction()
