function truth = inkwell_truth(arm)
% truth = inkwell_truth(arm)  The true values of a simulated arm as a structure, such as truth.true_position_x_m.
  truth = jsondecode(inkwell_mex('truth', arm));
end
