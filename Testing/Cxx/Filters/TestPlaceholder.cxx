#include "vtkDifferentiableHomeomorphism.h"
#include "vtkTriangularCoordinates.h"
#include "vtkHomeomorphismTransform.h"
#include "vtkCellArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPointData.h"
#include "vtkCellData.h"
#include "vtkPointSet.h"
#include <gtest/gtest.h>
#include <random>
static vtkSmartPointer<vtkPolyData> grid(int n, unsigned seed, double jitter)
{
  vtkNew<vtkPoints> p; p->SetDataTypeToDouble(); std::mt19937_64 g(seed); std::uniform_real_distribution<double> u(-jitter,jitter);
  for(int j=0;j<=n;j++)for(int i=0;i<=n;i++)p->InsertNextPoint(i+((i>0&&i<n)?u(g):0),j+((j>0&&j<n)?u(g):0),0);
  vtkNew<vtkCellArray> c; for(int j=0;j<n;j++)for(int i=0;i<n;i++){ vtkIdType a=j*(n+1)+i,b=a+1,d=a+n+1,e=d+1; c->InsertNextCell({a,b,e}); c->InsertNextCell({a,e,d}); }
  auto m=vtkSmartPointer<vtkPolyData>::New(); m->SetPoints(p); m->SetPolys(c); return m;
}
TEST(Smoke, RoundTrip)
{
  auto P=grid(20,1,.25),Q=grid(20,2,.25);
  vtkNew<vtkImageData> img; img->SetDimensions(301,301,1); img->SetSpacing(20/300.,20/300.,1);
  for(int sys=0;sys<3;sys++){
  vtkNew<vtkDifferentiableHomeomorphism> f; f->SetSourceData(P); f->SetTargetData(Q); f->SetDataObject(img); f->SetCoordinateSystem(sys); f->SetDiscordantTriangles(1); f->ComputeJacobianDeterminantOn(); f->ComputeTriangleIdOn();
  vtkNew<vtkDifferentiableHomeomorphism> b; b->SetSourceData(P); b->SetTargetData(Q); b->SetDataConnection(f->GetOutputPort()); b->SetCoordinateSystem(sys); b->SetDiscordantTriangles(1); b->InverseOn();
  b->Update();
  EXPECT_EQ(f->GetNumberOfOutsidePoints(),0); EXPECT_EQ(b->GetNumberOfOutsidePoints(),0);
  auto* o=vtkPointSet::SafeDownCast(b->GetOutputDataObject(0)); ASSERT_TRUE(o);
  double w=0; for(vtkIdType i=0;i<o->GetNumberOfPoints();i++){double x[3],y[3];o->GetPoint(i,x);img->GetPoint(i,y); w=std::max(w,hypot(x[0]-y[0],x[1]-y[1]));}
  double r[2]; o->GetPointData()->GetArray("JacobianDeterminant")->GetRange(r);
  printf("%d worst %g det %g %g type %s\n",sys,w,r[0],r[1],o->GetClassName());
  vtkNew<vtkHomeomorphismTransform> t; t->SetSource(P);t->SetTarget(Q);t->SetCoordinateSystem(sys);t->SetDiscordantTriangles(1);
  auto* fo=vtkPointSet::SafeDownCast(f->GetOutputDataObject(0));
  for(vtkIdType i=0;i<o->GetNumberOfPoints();i+=97){double x[3],y[3],z[3];img->GetPoint(i,x);t->TransformPoint(x,y);fo->GetPoint(i,z);for(int k=0;k<3;k++)EXPECT_EQ(y[k],z[k]); t->GetInverse()->TransformPoint(y,y); EXPECT_NEAR(x[0],y[0],1e-13);}
  }
  vtkNew<vtkTriangularCoordinates> tc; tc->SetInputData(0,P); tc->SetDataObject(img); tc->Update();
  printf("%s lines %lld tri arrays %d\n",tc->GetOutputDataObject(0)->GetClassName(),tc->GetLines()->GetNumberOfCells(),tc->GetTriangulation()->GetCellData()->GetNumberOfArrays());
}
