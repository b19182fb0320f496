function [events, lost] = inkwell_scene_events(arm)
% [events, lost] = inkwell_scene_events(arm)  The touches and buttons since the last call, oldest first, and the number
%                                             of lost events. The library stores 1024 events.
%
%   events(1).kind     'touched', 'left' (5 ms without contact), 'pressed' or 'released'
%   events(1).button   1 or 2 for a button, otherwise 0
%   events(1).time_s   board time
%   events(1).contact  the first of a touch, otherwise the last; its object is 0 without a contact
  [events, lost] = inkwell_mex('scene_events', arm);
end
