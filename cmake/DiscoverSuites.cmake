# Run after a test program is linked: writes one CTest test for each test suite, so that what a suite shares is made
# once. Suites over parameters, whose instances share nothing, are cut into shards.
# -DPROGRAM=… -DOUTPUT=… -DLABEL=… -DPREFIX=…
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "[;[]|]" "_" listed "${listed}")
string(REPLACE "\n" ";" listed "${listed}")
set(suites "")
foreach(line ${listed})
  if(line MATCHES "^([A-Za-z0-9_/]+)\\.( |$)")
    set(suite ${CMAKE_MATCH_1})
    list(APPEND suites ${suite})
    set(count_of_${suite} 0)
  elseif(line MATCHES "^  [A-Za-z0-9_/]")
    math(EXPR count_of_${suite} "${count_of_${suite}} + 1")
  endif()
endforeach()

# A quarter of a minute and more each (tools/test prints the slowest): these begin first, so that none is left alone at the end.
set(slow_suites ChallengeScript BesideLaws DocumentedCommands RealMachines RealRecordings Bystanders Relatives GivenArms Reproduce
  WeakSigns SlowRest DiagnoseAxes Wrench Of/Faults AnyRecording Pages)
set(tests_per_shard 8)
set(text "")
foreach(suite ${suites})
  set(shards 1)
  if(suite MATCHES "/")
    math(EXPR shards "(${count_of_${suite}} + ${tests_per_shard} - 1) / ${tests_per_shard}")
  endif()
  math(EXPR cost "${count_of_${suite}} / ${shards}")
  list(FIND slow_suites ${suite} slow)
  if(NOT slow EQUAL -1)
    math(EXPR cost "2000 - ${slow}")  # the longest first
  endif()
  foreach(shard RANGE 1 ${shards})
    set(name ${PREFIX}${suite})
    if(shards GREATER 1)
      string(APPEND name " ${shard} of ${shards}")
    endif()
    math(EXPR index "${shard} - 1")
    # Threads that wait must not take the processor from the tests beside them.
    string(APPEND text "add_test([=[${name}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=])\n"
      "set_tests_properties([=[${name}]=] PROPERTIES TIMEOUT 1800 LABELS ${LABEL} COST ${cost}\n"
      "  ENVIRONMENT \"OMP_WAIT_POLICY=passive;GTEST_TOTAL_SHARDS=${shards};GTEST_SHARD_INDEX=${index}\")\n")
  endforeach()
endforeach()
file(WRITE ${OUTPUT} "${text}")
