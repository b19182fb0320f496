% Checks that an action fails with an error that contains these words.
function refused(action, words)
  try
    action();
  catch error_of
    assert(! isempty(strfind(error_of.message, words)), "said instead: %s", error_of.message);
    return;
  end
  error("%s was not refused", func2str(action));
end
