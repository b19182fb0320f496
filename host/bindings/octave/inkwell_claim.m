function inkwell_claim(arm, on)
% inkwell_claim(arm)         Claims the arm without a force.
% inkwell_claim(arm, false)  Reduces the force to zero, removes the shapes and ends the claim.
  if nargin < 2
    on = true;
  end
  inkwell_mex('claim', arm, on);
end
