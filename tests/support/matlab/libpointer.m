classdef libpointer < handle
  % MATLAB's libpointer for Octave: a value that the called function changes in place.
  properties
    Value
  end
  methods
    function self = libpointer(~, value)
      self.Value = value;
    end
  end
end
