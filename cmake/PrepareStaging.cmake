# Run by CPack between installing to its temporary folder and packing: what Debian compresses is compressed, and all
# times are SOURCE_DATE_EPOCH, so that the same source gives the same bytes.
file(GLOB_RECURSE compressed LIST_DIRECTORIES OFF
  ${CPACK_TEMPORARY_DIRECTORY}/*/changelog.Debian ${CPACK_TEMPORARY_DIRECTORY}/dcnn*.1
  ${CPACK_TEMPORARY_DIRECTORY}/*/changelog)
foreach(file ${compressed})
  execute_process(COMMAND gzip -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
if(DEFINED ENV{SOURCE_DATE_EPOCH})
  execute_process(COMMAND find ${CPACK_TEMPORARY_DIRECTORY} -exec touch -h -d @$ENV{SOURCE_DATE_EPOCH} {} +
    COMMAND_ERROR_IS_FATAL ANY)
endif()
