function inkwell_priority(arm, priority)
% inkwell_priority(arm, priority)  Schedules the arm's threads with SCHED_FIFO and this priority, 1 to 99. 0 selects
%                                  normal scheduling.
  inkwell_mex('priority', arm, priority);
end
